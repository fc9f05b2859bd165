// SPDX-License-Identifier: BSD-3-Clause
package ladder_spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.event.ActionEvent;
import java.awt.image.BufferedImage;
import java.io.IOException;
import java.util.concurrent.atomic.AtomicBoolean;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JInternalFrame;
import javax.swing.JPanel;

import ladder_msgs.tof_frame_t;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** lcm-spy plugin: the live depth image of a head; near is bright, no return is dark blue. The spy finds it in the jar. */
public final class DepthImage implements SpyPlugin {
    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == tof_frame_t.LCM_FINGERPRINT;
    }

    @Override
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return new AbstractAction("Depth image") {
            @Override
            public void actionPerformed(ActionEvent event) {
                final JInternalFrame window = new JInternalFrame("Depth " + channel.name, true, true);
                window.add(new View(channel.name));
                window.pack();
                window.setVisible(true);
                desktop.add(window);
            }
        };
    }

    /** The newest frame of one channel. */
    private static final class View extends JPanel implements LCMSubscriber {
        private static final int NO_RETURN = new Color(0, 0, 60).getRGB();
        private final AtomicBoolean isSubscribed = new AtomicBoolean();
        private final String channel;
        private BufferedImage image;

        View(String channel) {
            this.channel = channel;
            setPreferredSize(new Dimension(448, 342));
        }

        @Override
        public void addNotify() {
            super.addNotify();
            if (isSubscribed.compareAndSet(false, true)) LCM.getSingleton().subscribe(channel, this);
        }

        @Override
        public void removeNotify() {
            if (isSubscribed.compareAndSet(true, false)) LCM.getSingleton().unsubscribe(channel, this);
            super.removeNotify();
        }

        @Override
        public void messageReceived(LCM lcm, String name, LCMDataInputStream bytes) {
            try {
                draw(new tof_frame_t(bytes));
            } catch (IOException | RuntimeException damaged) {
                return; // the spy itself counts undecodable messages
            }
            repaint();
        }

        private void draw(tof_frame_t frame) {
            final BufferedImage next = new BufferedImage(frame.width_px, frame.height_px, BufferedImage.TYPE_INT_RGB);
            for (int i = 0; i < frame.num_pixels; ++i) {
                next.setRGB(i % frame.width_px, i / frame.width_px, color(frame.depth_mm[i], frame.range_max_m));
            }
            synchronized (this) {
                image = next;
            }
        }

        private static int color(int depthMm, double rangeMaxM) {
            if (depthMm <= 0) return NO_RETURN;
            final double far = Math.min(1.0, 0.001 * depthMm / rangeMaxM);
            final int grey = (int) Math.round(255.0 * (1.0 - 0.9 * far));
            return new Color(grey, grey, grey).getRGB();
        }

        @Override
        protected void paintComponent(Graphics graphics) {
            super.paintComponent(graphics);
            synchronized (this) {
                if (image != null) graphics.drawImage(image, 0, 0, getWidth(), getHeight(), null);
            }
        }
    }
}
